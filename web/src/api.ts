// Requests to the server, and whether it is there.

/** The server answered that something is wrong. */
export class ServerError extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    message: string,
  ) {
    super(message);
  }
}

/** The server did not answer. */
export class ConnectionLost extends Error {}

/** Longest wait for an answer [ms]; one about the widest field of a long run takes a second. */
const PATIENCE_MS = 8000;

type Listener = (connected: boolean) => void;

const listeners: Listener[] = [];
let connected = true;

export function onConnection(listener: Listener): void {
  listeners.push(listener);
}

function setConnected(now: boolean): void {
  if (now !== connected) {
    connected = now;
    listeners.forEach((listener) => listener(now));
  }
}

async function request(path: string, patience: number): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, { cache: "no-store", signal: AbortSignal.timeout(patience) });
  } catch {
    setConnected(false);
    throw new ConnectionLost("the server does not answer");
  }
  setConnected(true);
  if (!response.ok) {
    let code = `http::${response.status}`;
    let message = response.statusText;
    try {
      const body = await response.json();
      code = body.error.code;
      message = body.error.message;
    } catch {
      // The status line is all there is.
    }
    throw new ServerError(response.status, code, message);
  }
  return response;
}

/** A document of the server. */
export async function getJson<T>(
  path: string,
  query: Record<string, string | number> = {},
  patience = PATIENCE_MS,
): Promise<T> {
  const parts = Object.entries(query).map(([k, v]) => `${k}=${encodeURIComponent(v)}`);
  const response = await request(parts.length ? `${path}?${parts.join("&")}` : path, patience);
  try {
    return (await response.json()) as T;
  } catch {
    setConnected(false);
    throw new ConnectionLost("the server's answer broke off");
  }
}

/** A file of the store; null when it does not exist. */
export async function getStoreFile(path: string): Promise<ArrayBuffer | null> {
  try {
    return await getBytes(`store/${encodePath(path)}`);
  } catch (error) {
    if (error instanceof ServerError && error.status === 404) {
      return null;
    }
    throw error;
  }
}

/** Arrays with one axis, one after the other as doubles; `wanted`: rows and path of each. */
export function getVectors(wanted: [number, string][]): Promise<ArrayBuffer> {
  const parts = wanted.map(([rows, path]) => `array=${rows}:${encodePath(path)}`);
  return getBytes(`api/vectors?${parts.join("&")}`);
}

function encodePath(path: string): string {
  return path.split("/").map(encodeURIComponent).join("/");
}

async function getBytes(path: string): Promise<ArrayBuffer> {
  const response = await request(path, PATIENCE_MS);
  try {
    return await response.arrayBuffer();
  } catch {
    setConnected(false);
    throw new ConnectionLost("the server's answer broke off");
  }
}
