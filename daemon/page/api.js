// Requests to the service that sent this page.

let token = sessionStorage.getItem("weir-token") ?? "";

/** Sets the token, without blanks that were pasted with it. */
export function set_token(text) {
  token = text.trim();
  sessionStorage.setItem("weir-token", token);
}

/** A failed request. Status 0: no answer came. `answer` is the body of the service's answer. */
export class ApiError extends Error {
  constructor(status, message, answer = {}) {
    super(message);
    Object.assign(this, {status, answer});
  }
}

async function answer_of(method, path) {
  const headers = {"X-Weir": "page"};
  if (token) headers.Authorization = `Bearer ${token}`;
  try {
    return await fetch(path, {method, headers, signal: AbortSignal.timeout(10000)});
  } catch {
    throw new ApiError(0, "The service does not answer.");
  }
}

async function json_of(method, path) {
  const response = await answer_of(method, path);
  let body;
  try {
    body = await response.json();
  } catch {
    throw new ApiError(response.status, `The service answered ${response.status} without JSON.`);
  }
  if (!response.ok) throw new ApiError(response.status, body.error, body);
  return body;
}

export const get = (path) => json_of("GET", path);
export const post = (path) => json_of("POST", path);

/** Returns the query text of the parameters that are not null. */
export function query(parameters) {
  return new URLSearchParams(Object.entries(parameters).filter(([, value]) => value !== null)).toString();
}

const kPicturesKept = 200;
const pictures = new Map();  // URL -> promise of an object URL, oldest first; used only if a token is needed

// An <img> cannot send the token, so the picture is fetched and shown from memory.
function fetched_picture(url) {
  if (!pictures.has(url)) {
    pictures.set(url, answer_of("GET", url).then(async (response) => {
      if (!response.ok) throw new ApiError(response.status, "no thumbnail");
      return URL.createObjectURL(await response.blob());
    }));
    if (pictures.size > kPicturesKept) {
      const [oldest, picture] = pictures.entries().next().value;
      pictures.delete(oldest);
      picture.then(URL.revokeObjectURL, () => {});
    }
  }
  return pictures.get(url);
}

/** Returns a decoded <img> of the job's output `index`; throws if there is no thumbnail. */
export async function thumbnail(job, index, text) {
  const url = `/api/jobs/${job.id}/thumbnails/${index}?changed=${job.changed_at}`;
  const image = new Image();
  image.alt = text;
  image.src = token ? await fetched_picture(url) : url;
  await image.decode();
  return image;
}
